// The engine's own Vulkan: a device with one queue, buffers, images, barriers. Nothing here is Arealight's.

#pragma once

#include <vulkan/vulkan.h>

#include <cctype>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <stdexcept>
#include <string>
#include <vector>

constexpr uint32_t WIDTH = 256, HEIGHT = 160;

inline void check(VkResult result, const char *call) {
    if (result != VK_SUCCESS) {
        throw std::runtime_error(std::string(call) + " failed: " + std::to_string(result));
    }
}

inline VKAPI_ATTR VkBool32 VKAPI_CALL count_message(VkDebugUtilsMessageSeverityFlagBitsEXT, VkDebugUtilsMessageTypeFlagsEXT,
                                             const VkDebugUtilsMessengerCallbackDataEXT *data, void *count) {
    std::fprintf(stderr, "validation: %s\n", data->pMessage);
    ++*static_cast<int *>(count);
    return VK_FALSE;
}

struct Buffer {
    VkBuffer handle;
    void *mapped;
};

struct Image {
    VkImage handle;
    VkImageView view;
};

// The engine's device, with one queue that computes.
struct Engine {
    VkInstance instance = VK_NULL_HANDLE;
    VkDebugUtilsMessengerEXT messenger = VK_NULL_HANDLE;
    VkPhysicalDevice physical_device = VK_NULL_HANDLE;
    VkDevice device = VK_NULL_HANDLE;
    uint32_t family = 0;
    VkQueue queue = VK_NULL_HANDLE;
    VkPhysicalDeviceMemoryProperties memories = {};
    // What was made lives as long as the device
    std::vector<VkDeviceMemory> allocations;
    std::vector<VkBuffer> buffers;
    std::vector<Image> images;
    int messages = 0;

    explicit Engine(const std::string &validation) {
        make_instance(validation);
        choose_device();
        float priority = 1.0f;
        const VkDeviceQueueCreateInfo queues = {VK_STRUCTURE_TYPE_DEVICE_QUEUE_CREATE_INFO, nullptr, 0, family, 1, &priority};
        VkDeviceCreateInfo info = {VK_STRUCTURE_TYPE_DEVICE_CREATE_INFO}; // no extension, no feature
        info.queueCreateInfoCount = 1;
        info.pQueueCreateInfos = &queues;
        check(vkCreateDevice(physical_device, &info, nullptr, &device), "vkCreateDevice");
        vkGetDeviceQueue(device, family, 0, &queue);
        vkGetPhysicalDeviceMemoryProperties(physical_device, &memories);
    }

    void make_instance(const std::string &validation) {
        const VkApplicationInfo application = {VK_STRUCTURE_TYPE_APPLICATION_INFO, nullptr, nullptr, 0, nullptr, 0,
                                               VK_API_VERSION_1_1};
        const VkDebugUtilsMessengerCreateInfoEXT messages_info = {
            VK_STRUCTURE_TYPE_DEBUG_UTILS_MESSENGER_CREATE_INFO_EXT, nullptr, 0,
            VK_DEBUG_UTILS_MESSAGE_SEVERITY_WARNING_BIT_EXT | VK_DEBUG_UTILS_MESSAGE_SEVERITY_ERROR_BIT_EXT,
            VK_DEBUG_UTILS_MESSAGE_TYPE_VALIDATION_BIT_EXT | VK_DEBUG_UTILS_MESSAGE_TYPE_PERFORMANCE_BIT_EXT,
            count_message, &messages};
        std::vector<VkValidationFeatureEnableEXT> enabled;
        if (validation == "synchronization") {
            enabled = {VK_VALIDATION_FEATURE_ENABLE_SYNCHRONIZATION_VALIDATION_EXT};
        } else if (validation == "gpu-assisted") {
            enabled = {VK_VALIDATION_FEATURE_ENABLE_GPU_ASSISTED_EXT,
                       VK_VALIDATION_FEATURE_ENABLE_GPU_ASSISTED_RESERVE_BINDING_SLOT_EXT};
        }
        const VkValidationFeaturesEXT features = {VK_STRUCTURE_TYPE_VALIDATION_FEATURES_EXT, &messages_info,
                                                  (uint32_t)enabled.size(), enabled.data(), 0, nullptr};

        const char *layer = "VK_LAYER_KHRONOS_validation";
        const char *extension = VK_EXT_DEBUG_UTILS_EXTENSION_NAME;
        VkInstanceCreateInfo info = {VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO, nullptr, 0, &application};
        if (!validation.empty()) {
            info = {VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO, &features, 0, &application, 1, &layer, 1, &extension};
        }
        check(vkCreateInstance(&info, nullptr, &instance), "vkCreateInstance");
        if (!validation.empty()) {
            auto make = (PFN_vkCreateDebugUtilsMessengerEXT)vkGetInstanceProcAddr(instance,
                                                                                  "vkCreateDebugUtilsMessengerEXT");
            check(make(instance, &messages_info, nullptr, &messenger), "vkCreateDebugUtilsMessengerEXT");
        }
    }

    // Whether AREALIGHT_DEVICE, where it is set, means a device: its number, or a part of its name.
    static bool is_wanted(VkPhysicalDevice device, size_t number) {
        const char *wanted = std::getenv("AREALIGHT_DEVICE");
        if (!wanted) {
            return true;
        }
        VkPhysicalDeviceProperties properties;
        vkGetPhysicalDeviceProperties(device, &properties);
        auto lower = [](std::string text) {
            for (char &letter : text) {
                letter = (char)std::tolower((unsigned char)letter);
            }
            return text;
        };
        return std::to_string(number) == wanted
               || lower(properties.deviceName).find(lower(wanted)) != std::string::npos;
    }

    // Takes the first device that is wanted and has a queue which computes.
    void choose_device() {
        uint32_t count = 0;
        check(vkEnumeratePhysicalDevices(instance, &count, nullptr), "vkEnumeratePhysicalDevices");
        std::vector<VkPhysicalDevice> devices(count);
        check(vkEnumeratePhysicalDevices(instance, &count, devices.data()), "vkEnumeratePhysicalDevices");
        for (size_t number = 0; number < devices.size(); number++) {
            VkPhysicalDevice candidate = devices[number];
            if (!is_wanted(candidate, number)) {
                continue;
            }
            uint32_t family_count = 0;
            vkGetPhysicalDeviceQueueFamilyProperties(candidate, &family_count, nullptr);
            std::vector<VkQueueFamilyProperties> families(family_count);
            vkGetPhysicalDeviceQueueFamilyProperties(candidate, &family_count, families.data());
            for (family = 0; family < family_count; family++) {
                if (families[family].queueFlags & VK_QUEUE_COMPUTE_BIT) {
                    physical_device = candidate;
                    return;
                }
            }
        }
        throw std::runtime_error("no Vulkan device with a compute queue, or none that AREALIGHT_DEVICE means");
    }

    VkDeviceMemory allocate(uint64_t size, uint32_t type_bits, VkMemoryPropertyFlags wanted) {
        for (uint32_t type = 0; type < memories.memoryTypeCount; type++) {
            bool has = (memories.memoryTypes[type].propertyFlags & wanted) == wanted;
            if ((type_bits >> type & 1) && has) {
                const VkMemoryAllocateInfo info = {VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO, nullptr, size, type};
                VkDeviceMemory memory;
                check(vkAllocateMemory(device, &info, nullptr, &memory), "vkAllocateMemory");
                allocations.push_back(memory);
                return memory;
            }
        }
        throw std::runtime_error("no memory of the type that is needed");
    }

    // A buffer that the CPU writes and reads.
    Buffer buffer(uint64_t size, VkBufferUsageFlags usage, const void *content = nullptr) {
        const VkBufferCreateInfo info = {VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO, nullptr, 0, size, usage};
        Buffer made = {};
        check(vkCreateBuffer(device, &info, nullptr, &made.handle), "vkCreateBuffer");
        buffers.push_back(made.handle);
        VkMemoryRequirements needed;
        vkGetBufferMemoryRequirements(device, made.handle, &needed);
        VkDeviceMemory memory = allocate(needed.size, needed.memoryTypeBits,
                                         VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT);
        check(vkBindBufferMemory(device, made.handle, memory, 0), "vkBindBufferMemory");
        check(vkMapMemory(device, memory, 0, VK_WHOLE_SIZE, 0, &made.mapped), "vkMapMemory");
        if (content) {
            std::memcpy(made.mapped, content, size);
        }
        return made;
    }

    Image image(VkFormat format, VkImageUsageFlags usage) {
        const VkImageCreateInfo info = {VK_STRUCTURE_TYPE_IMAGE_CREATE_INFO, nullptr, 0, VK_IMAGE_TYPE_2D, format,
                                        {WIDTH, HEIGHT, 1}, 1, 1, VK_SAMPLE_COUNT_1_BIT, VK_IMAGE_TILING_OPTIMAL, usage};
        Image made = {};
        check(vkCreateImage(device, &info, nullptr, &made.handle), "vkCreateImage");
        VkMemoryRequirements needed;
        vkGetImageMemoryRequirements(device, made.handle, &needed);
        VkDeviceMemory memory = allocate(needed.size, needed.memoryTypeBits, 0);
        check(vkBindImageMemory(device, made.handle, memory, 0), "vkBindImageMemory");
        const VkImageViewCreateInfo view = {VK_STRUCTURE_TYPE_IMAGE_VIEW_CREATE_INFO, nullptr, 0, made.handle,
                                            VK_IMAGE_VIEW_TYPE_2D, format, {}, {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1}};
        check(vkCreateImageView(device, &view, nullptr, &made.view), "vkCreateImageView");
        images.push_back(made);
        return made;
    }

    // Destroys the device with what was made, and returns how many messages of the validation layer there were.
    int close() {
        for (const Image &image : images) {
            vkDestroyImageView(device, image.view, nullptr);
            vkDestroyImage(device, image.handle, nullptr);
        }
        for (VkBuffer buffer : buffers) {
            vkDestroyBuffer(device, buffer, nullptr);
        }
        for (VkDeviceMemory memory : allocations) {
            vkFreeMemory(device, memory, nullptr);
        }
        vkDestroyDevice(device, nullptr);
        if (messenger) {
            auto destroy_messenger = (PFN_vkDestroyDebugUtilsMessengerEXT)vkGetInstanceProcAddr(
                instance, "vkDestroyDebugUtilsMessengerEXT");
            destroy_messenger(instance, messenger, nullptr);
        }
        vkDestroyInstance(instance, nullptr);
        return messages;
    }
};

inline void barrier(VkCommandBuffer commands, VkImage image, VkPipelineStageFlags before, VkAccessFlags written,
             VkImageLayout from, VkPipelineStageFlags after, VkAccessFlags next, VkImageLayout to) {
    const VkImageMemoryBarrier info = {VK_STRUCTURE_TYPE_IMAGE_MEMORY_BARRIER, nullptr, written, next, from, to,
                                       VK_QUEUE_FAMILY_IGNORED, VK_QUEUE_FAMILY_IGNORED, image,
                                       {VK_IMAGE_ASPECT_COLOR_BIT, 0, 1, 0, 1}};
    vkCmdPipelineBarrier(commands, before, after, 0, 0, nullptr, 0, nullptr, 1, &info);
}

inline VkBufferImageCopy whole_image() {
    return {0, 0, 0, {VK_IMAGE_ASPECT_COLOR_BIT, 0, 0, 1}, {}, {WIDTH, HEIGHT, 1}};
}
